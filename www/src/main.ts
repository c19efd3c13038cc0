import '@fontsource-variable/geist/wght.css';
import '@fontsource-variable/geist-mono/wght.css';
import './styles/base.css';
import './styles/stage.css';
import './styles/panel.css';
import './styles/dock.css';
import './styles/small.css';
import { App } from './app';

new App();
